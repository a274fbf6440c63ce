from zwidth.passivity.bounding import Bounding as Bounding
from zwidth.passivity.bounding import check_bounding as check_bounding
from zwidth.passivity.formulas.abbott_okamura import Counterexample as Counterexample
from zwidth.passivity.formulas.abbott_okamura import StiffnessLimits as StiffnessLimits
from zwidth.passivity.formulas.abbott_okamura import abbott_okamura_stiffness as abbott_okamura_stiffness
from zwidth.passivity.formulas.abbott_okamura import damped_wall_friction as damped_wall_friction
from zwidth.passivity.formulas.abbott_okamura import edge_crossing as edge_crossing
from zwidth.passivity.formulas.abbott_okamura import fast_press as fast_press
from zwidth.passivity.formulas.abbott_okamura import linear_worst_case as linear_worst_case
from zwidth.passivity.formulas.abbott_okamura import (
    quantized_kelvin_voigt_friction as quantized_kelvin_voigt_friction,
)
from zwidth.passivity.formulas.abbott_okamura import worst_case as worst_case
from zwidth.passivity.formulas.colgate_schenkel import damped_wall_damping as damped_wall_damping
from zwidth.passivity.formulas.colgate_schenkel import kelvin_voigt_damping as kelvin_voigt_damping
from zwidth.passivity.formulas.colgate_schenkel import spring_damping as spring_damping
from zwidth.passivity.formulas.colgate_schenkel import spring_stiffness as spring_stiffness
from zwidth.passivity.formulas.colgate_schenkel import window_damping as window_damping
from zwidth.passivity.formulas.diolaiti import PlanePoint as PlanePoint
from zwidth.passivity.formulas.diolaiti import admissible_speed as admissible_speed
from zwidth.passivity.formulas.diolaiti import plane_point as plane_point
from zwidth.passivity.formulas.standard_linear_solid import (
    standard_linear_solid_damping as standard_linear_solid_damping,
)
