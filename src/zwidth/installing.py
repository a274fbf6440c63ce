def line(extra: str) -> str:
    """What to type for an extra."""
    return f"pip install '.[{extra}]'"
