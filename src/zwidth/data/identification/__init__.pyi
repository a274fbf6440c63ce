from zwidth.data.identification.device.identify import Identified as Identified
from zwidth.data.identification.device.plan import MeasurementPlan as MeasurementPlan
from zwidth.data.identification.device.published import PublishedFit as PublishedFit
from zwidth.data.identification.device.published import identify_published as identify_published
from zwidth.data.identification.finger import IdentifiedFinger as IdentifiedFinger
from zwidth.data.identification.finger import identify_finger as identify_finger
from zwidth.data.logs import Log as Log
