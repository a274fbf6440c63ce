"""Two arms that follow each other."""
