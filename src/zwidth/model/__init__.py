"""What is in the loop: the device, what it renders and by which law, the hand, arms, pairs of arms."""
