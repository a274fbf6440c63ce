from zwidth.passivity.ports.extracting_input import ExtractingInput as ExtractingInput
from zwidth.passivity.ports.index import PassivityIndex as PassivityIndex
from zwidth.passivity.ports.indices import PassivityIndices as PassivityIndices
from zwidth.passivity.ports.indices import passivity_indices as passivity_indices
