from zwidth.passivity.workspace import stiffness_over_postures as stiffness_over_postures
from zwidth.study.maps.lines import stability_boundary as stability_boundary
from zwidth.study.maps.run import robust_boundary as robust_boundary
from zwidth.study.maps.run import z_width as z_width
from zwidth.study.maps.run import z_width_certificate as z_width_certificate
from zwidth.study.maps.walls import z_width_factors as z_width_factors
from zwidth.study.sweeps.files import load_sweep as load_sweep
