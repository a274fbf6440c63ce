"""Files are written whole or not at all, whatever stands in their place."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest

import zwidth as zw
from zwidth.passivity.document import save_json
from zwidth.writing import writing_whole

LOOP = zw.Device(mass=0.04, damping=0.15, sample_period=0.001), zw.Wall(200)


def test_what_fails_half_way_leaves_the_old_file(tmp_path: Path) -> None:
    """The new text is nowhere, not even under another name."""
    path = tmp_path / "proof.json"
    save_json(path, {"whole": 1})
    old = path.read_text(encoding="utf-8")

    def half() -> None:
        with writing_whole(path) as unfinished:
            unfinished.write_text("{", encoding="utf-8")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        half()
    assert path.read_text(encoding="utf-8") == old
    assert list(tmp_path.iterdir()) == [path]


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    """The file that it names is written."""
    link, file = tmp_path / "link.json", tmp_path / "file.json"
    link.symlink_to(file)
    save_json(link, {"whole": 1})
    assert link.is_symlink()
    assert file.read_text(encoding="utf-8") == '{\n  "whole": 1\n}\n'


@pytest.mark.skipif(not Path("/dev/null").is_char_device(), reason="there is no /dev/null")
def test_a_device_stays_a_device() -> None:
    """Nothing is put in the place of /dev/null."""
    save_json("/dev/null", {"whole": 1})
    assert Path("/dev/null").is_char_device()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no full device to write to")
def test_a_full_device_is_one_message() -> None:
    """As for a full disk."""
    with pytest.raises(zw.InputError, match=f"/dev/full cannot be written: {os.strerror(errno.ENOSPC)}"):
        save_json("/dev/full", {"whole": 1})


def test_a_place_that_is_not_there_is_said(tmp_path: Path) -> None:
    """Of verdicts, certificates, maps of arms and pictures alike."""
    verdict = zw.check(*LOOP)
    assert verdict.certificate is not None
    for save in (verdict.save, verdict.certificate.save):
        with pytest.raises(zw.InputError, match=f"cannot be written: {os.strerror(errno.ENOENT)}"):
            save(tmp_path / "none" / "proof.json")
    with pytest.raises(zw.InputError, match="cannot be written"):
        verdict.save(tmp_path / "zero\0byte.json")
