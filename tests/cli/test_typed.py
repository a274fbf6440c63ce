"""What a message names is named as it was typed."""

import pytest

from zwidth.cli.parsing import as_typed

LOOP = "check haptic-paddle --stiffness 3"


@pytest.mark.parametrize(
    ("argv", "said"),
    [
        (f"{LOOP} --coulomb-friction -1", "haptic-paddle: --coulomb-friction must be ≥ 0 N, got -1"),
        (f"{LOOP} --virtual-damping x", "command line: --virtual-damping is in N*s/m; got"),
        (f"{LOOP} --sample-period=0", "haptic-paddle: --sample-period must be > 0 s"),
        (f"{LOOP} --velocity-filter foo", '--velocity-filter: there is no type "foo"'),
        (f"{LOOP} --active-below '2 kHz'", "--active-below must be > 0 and at most half the rate"),
        ("check haptic-paddle --stiffness=-3", "--stiffness must be ≥ 0"),
        ("pair haptic-paddle --stiffness 3 --link-delay x", "--link-delay is in s; got"),
        ("plan haptic-paddle --force-noise 0", "--force-noise must be > 0"),
    ],
)
def test_an_option_is_named_as_it_was_typed(refused, argv, said):
    """In one line, and not twice."""
    message = refused(argv)
    assert said in message
    assert "----" not in message


def test_words_that_only_look_like_it_stay():
    """A key of a file that nobody typed, the value typed, an everyday word in the middle."""
    assert as_typed("a.toml: damping must be > 0", ["check", "a.toml"]) == "a.toml: damping must be > 0"
    assert as_typed("the rate is too low", ["--rate", "3"]) == "the rate is too low"
    assert as_typed('rate is in Hz; got "rate"', ["--rate", "rate"]) == '--rate is in Hz; got "rate"'
    assert as_typed("damping is in N", ["--virtual-damping", "1", "--damping", "x"]) == "--damping is in N"
