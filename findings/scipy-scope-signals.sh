#!/usr/bin/env bash
# scipy 1.17.1: the signals of a Simulink scope change their kind with their number.
#
# "Structure with time": scope.signals is a struct array, one element for each axis of the scope. Seen with
# simplify_cells=True:
#   one signal    scope["signals"] is a dictionary: signals["values"]
#   two signals   it is a list: signals[0]["values"]; signals["values"] raises TypeError
#   two samples of one signal come as (2,), two samples of two axes as (2, 2), and one sample of both as (2,): the first and the last
#   have one shape and other meanings
# Where it bites: an analysis written for a log of the position alone ends once the force is shown, too; and
# of a log of one sample two axes are taken for two samples.
# Instead: loadmat without squeezing (signals[0, k]["values"][0, 0] is always samples by axes), or test for a
# dictionary and reshape to (len(time), -1).
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check scipy==1.17.1 numpy==2.4.6
cd "$work"
venv/bin/python - <<'PYTHON'
import io

import numpy as np
from scipy.io import loadmat, savemat


def scope(*signals):
    array = np.zeros((1, len(signals)), dtype=[("values", object), ("label", object)])
    for number, (label, values) in enumerate(signals):
        array[0, number] = (np.array(values, float), label)
    file = io.BytesIO()
    savemat(file, {"scope": {"time": np.arange(len(signals[0][1])).reshape(-1, 1), "signals": array}})
    file.seek(0)
    simple = loadmat(file, simplify_cells=True)["scope"]["signals"]
    file.seek(0)
    plain = loadmat(file)["scope"][0, 0]["signals"][0, 0]["values"]
    return simple, plain.shape


one, one_plain = scope(("position", [[1], [2]]))
two, two_plain = scope(("position", [[1], [2]]), ("force", [[3], [4]]))
axes, axes_plain = scope(("position", [[1, 5], [2, 6]]))
single, single_plain = scope(("position", [[1, 5]]))
print("one signal:", one, "\ntwo signals:", two)
print("shapes:", one["values"].shape, axes["values"].shape, single["values"].shape, "unsqueezed", one_plain, axes_plain, single_plain)
assert isinstance(one, dict) and isinstance(two, list)
assert (one["values"].shape, axes["values"].shape, single["values"].shape) == ((2,), (2, 2), (2,))
assert (one_plain, two_plain, axes_plain, single_plain) == ((2, 1), (2, 1), (2, 2), (1, 2))
print("as described")
PYTHON
