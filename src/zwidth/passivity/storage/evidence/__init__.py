"""What a value iteration leaves: a storage function as a certificate, a cycle as a motion that gains."""
