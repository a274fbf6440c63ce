"""Value iteration, and the kernels that improve V on each kind of grid."""
