"""The command on arms of several joints."""
