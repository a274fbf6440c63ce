"""Laws that look ahead: of the hold, of the surface, of slow environments."""
