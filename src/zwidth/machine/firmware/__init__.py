"""What is proved is what is flashed: the step functions of a law as C99 and JavaScript."""
