from zwidth.data.diagnosis.causes import CAUSES as CAUSES
from zwidth.data.diagnosis.change import Change as Change
from zwidth.data.diagnosis.pairs.diagnose import PairDiagnosis as PairDiagnosis
from zwidth.data.diagnosis.pairs.diagnose import diagnose_pair as diagnose_pair
from zwidth.data.diagnosis.pairs.energy import PAIR_CAUSES as PAIR_CAUSES
from zwidth.data.diagnosis.reason import diagnose as diagnose
from zwidth.data.diagnosis.result import Diagnosis as Diagnosis
