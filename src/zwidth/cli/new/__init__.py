"""The command that asks for a device or an environment, question by question, and writes its file."""
