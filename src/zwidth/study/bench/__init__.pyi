from zwidth.study.bench.bench import compare as compare
from zwidth.study.bench.bench import standard_laws as standard_laws
from zwidth.study.bench.comparison import LawComparison as LawComparison
