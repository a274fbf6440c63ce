"""A relaxation, creep or loading test, from a spreadsheet to a tissue with intervals and a wall to render."""
