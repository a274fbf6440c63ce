from zwidth.identification.device.identified import Identified as Identified
from zwidth.identification.device.plan import MeasurementPlan as MeasurementPlan
from zwidth.identification.device.published import PublishedFit as PublishedFit
from zwidth.identification.device.published import identify_published as identify_published
from zwidth.identification.finger import IdentifiedFinger as IdentifiedFinger
from zwidth.identification.finger import identify_finger as identify_finger
