"""What tissue was it?  Reads relaxation.csv, fits four models, asks whether a device may render one."""

import zwidth as zw

(test,) = zw.read_log("relaxation.csv").blocks()
print(zw.tissue.compare_tissues(test.time, test.position, test.hand_force))  # the best first

tissue = zw.tissue.fit_tissue(test.time, test.position, test.hand_force)  # a standard linear solid
print(tissue)
print(tissue.verdict(zw.catalogue.device("phantom")).claim)
