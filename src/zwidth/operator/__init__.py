"""The operator: the hand that moves the device."""
