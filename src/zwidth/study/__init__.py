"""Many loops: laws beside each other, maps over parameters, tables of loops."""
