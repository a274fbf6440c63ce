"""Traces made to fill the memory or to lead to other files are refused in a line."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import zwidth as zw
from zwidth import reading


@pytest.fixture
def saved(finger, tmp_path: Path) -> Path:
    path = tmp_path / "touch.nc"
    finger.zwidth.save(path)
    assert zw.traces.load_trace(path).identical(finger)
    return path


def refused(path: Path, message: str) -> None:
    with pytest.raises(zw.InputError, match=message) as caught:
        zw.traces.load_trace(path)
    assert "\n" not in str(caught.value)


def test_netcdf_that_declares_more_than_it_holds_is_refused(saved: Path) -> None:
    with h5py.File(saved, "r+") as file:
        file.create_dataset("more", shape=(2**50,), dtype="f8", chunks=(2**10,))
    refused(saved, "would become")


@pytest.mark.parametrize("inside", ["position", "group/position"])
def test_netcdf_does_not_lead_to_other_files(inside: str, saved: Path, tmp_path: Path) -> None:
    with h5py.File(tmp_path / "other.h5", "w") as other, h5py.File(saved, "r+") as file:
        other["position"] = file["position"][:]
        if inside in file:
            del file[inside]
        file[inside] = h5py.ExternalLink("other.h5", "/position")
    refused(saved, "in another file")


def test_numbers_of_netcdf_are_in_it(saved: Path, tmp_path: Path) -> None:
    secret = tmp_path / "secret"
    secret.write_bytes(np.arange(100.0).tobytes())
    with h5py.File(saved, "r+") as file:
        file.create_dataset("secret", shape=(100,), dtype="f8", external=[(str(secret), 0, 800)])
    refused(saved, "are elsewhere")


@pytest.mark.parametrize(
    ("key", "value"), [("motion", "sideways"), ("motion", [1.0, 2.0]), ("stops", [1.0, 2.0]), ("stops", "no")]
)
def test_attributes_that_are_wrong_are_refused(key: str, value: object, saved: Path) -> None:
    with h5py.File(saved, "r+") as file:
        file.attrs[key] = value
    refused(saved, f"attribute {key}")


def test_parquet_that_grows_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reading, "FREE", 2**20)
    path = tmp_path / "touch.parquet"
    pq.write_table(pa.table({"time_s": np.zeros(10**6)}), path)
    refused(path, "would become")
