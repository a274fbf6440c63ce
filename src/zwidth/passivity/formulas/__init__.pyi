from zwidth.passivity.bounding import Bounding as Bounding
from zwidth.passivity.bounding import check_bounding as check_bounding
from zwidth.passivity.formulas import closed_forms as closed_forms
from zwidth.passivity.formulas import quantization as quantization
