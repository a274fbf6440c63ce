"""What a thing of a registry must be given, made from its fields: a new one is tested without an example."""

from __future__ import annotations

from zwidth.model.kind import Kind


def needed(kind: Kind) -> dict[str, str]:
    """A number with its unit for each key that has no default; what is more than numbers needs an example."""
    keys = {key: own for key, own in kind.keys.items() if own.required}
    assert all(own.is_number for own in keys.values()), f"give an example of {kind.class_name}"
    return {
        key: f"{value} {own.unit_for('linear')}".removesuffix(" 1")
        for value, (key, own) in enumerate(keys.items(), start=2)
    }
