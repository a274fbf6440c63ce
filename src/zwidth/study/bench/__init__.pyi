from zwidth.study.bench.bench import LawComparison as LawComparison
from zwidth.study.bench.bench import compare as compare
from zwidth.study.bench.laws import standard_laws as standard_laws
