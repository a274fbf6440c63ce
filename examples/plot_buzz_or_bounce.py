"""
Does it buzz or does it bounce?
===============================

A wall beyond 2b/T is unstable: it throws the hand out.  A wall beyond 2f_c/Δ
does something else.  Here the paddle's encoder is made 100 times coarser: each
time the hand creeps over an edge of the encoder, the wall pushes back harder
than it resisted, and Coulomb friction cannot take all of it.  The hand feels
something alive under it, "active tactile" in the words of Abbott & Okamura.
"""

import matplotlib.pyplot as plt

import zwidth as zw
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
paddle = zw.catalogue.device("haptic-paddle")
coarse = paddle.replace(resolution="0.00224")
verdict = zw.check(coarse, zw.Wall(stiffness=150))

# %%
# 150 N/m is half of 2b/T, and yet the loop is active.  The motion that shows it
# goes over one edge (dotted) and back, again and again: on the way in there is
# no more force than before the edge, on the way out there is.

figure, rows = plt.subplots(3, 1, sharex=True, figsize=(6.4, 5), layout="constrained")
plots.draw_witness(rows, verdict)

# %%
# The number: what this encoder allows, 2f_c/Δ.

print(f"{verdict.limit}: largest passive stiffness {verdict.max_stiffness:.4g} N/m")
plt.show()
