"""
Why are there two limits, and how slow is slow enough?
======================================================

Over one sample the wall takes J* more energy than an ideal spring would, at the
worst phase of the encoder (Abbott & Okamura 2005, figures 4 and 5).  Below 2b/T
the curve is bent upwards: what going in may win is less than what going out
loses, as long as the line falls less to the left than it rises to the right,
which is 2f_c/Δ.  Beyond 2b/T it is bent downwards: no friction helps against a
hand that is fast enough.
"""

import matplotlib.pyplot as plt

import zwidth as zw
from zwidth.passivity.formulas.diolaiti import admissible_speed
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
paddle = zw.catalogue.device("haptic-paddle")
coarse = paddle.replace(resolution=0.001, name="encoder of 1 mm")

# %%
# Left: 200 N/m with an encoder so coarse that compression can win a little.
# Right: 770 N/m with the paddle's own encoder.

figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 3.9), layout="constrained")
plots.draw_worst_case(left, coarse, 200, span=0.004)
plots.draw_worst_case(right, paddle, 770)

# %%
# The number: at 770 N/m no motion slower than this gains energy, although the
# wall is not passive.

print(f"admissible speed at 770 N/m: {admissible_speed(paddle, 770):.3f} m/s")
plt.show()
