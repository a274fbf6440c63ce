from zwidth.diagnosis.causes import CAUSES as CAUSES
from zwidth.diagnosis.change import Change as Change
from zwidth.diagnosis.diagnose import diagnose as diagnose
from zwidth.diagnosis.result import Diagnosis as Diagnosis
