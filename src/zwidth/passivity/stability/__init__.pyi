from zwidth.model.operator.hand_impedance import HandImpedance as HandImpedance
from zwidth.passivity.stability.absolute import AbsoluteStability as AbsoluteStability
from zwidth.passivity.stability.absolute import absolute_stability as absolute_stability
from zwidth.passivity.stability.active_hand import ToleratedActivity as ToleratedActivity
from zwidth.passivity.stability.active_hand import tolerated_activity as tolerated_activity
from zwidth.passivity.stability.known_hand import Stability as Stability
from zwidth.passivity.stability.known_hand import coupled_stability as coupled_stability
from zwidth.passivity.stability.virtual_mass import stable_virtual_masses as stable_virtual_masses
