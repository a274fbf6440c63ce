"""Commands on two arms, the links between them, and the gains of robot arms."""
