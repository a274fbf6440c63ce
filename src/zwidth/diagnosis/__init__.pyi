from zwidth.diagnosis.causes import CAUSES as CAUSES
from zwidth.diagnosis.change import Change as Change
from zwidth.diagnosis.diagnose import diagnose as diagnose
from zwidth.diagnosis.pairs.causes import PAIR_CAUSES as PAIR_CAUSES
from zwidth.diagnosis.pairs.diagnose import diagnose_pair as diagnose_pair
from zwidth.diagnosis.pairs.result import PairDiagnosis as PairDiagnosis
from zwidth.diagnosis.result import Diagnosis as Diagnosis
