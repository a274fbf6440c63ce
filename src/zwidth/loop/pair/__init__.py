"""Two arms and the link between them, closed in time."""
