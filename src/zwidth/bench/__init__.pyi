from zwidth.bench.bench import LawComparison as LawComparison
from zwidth.bench.bench import compare as compare
from zwidth.bench.laws import standard_laws as standard_laws
