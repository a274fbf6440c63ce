"""A loop on a page: every parameter on a slider, the verdict beside it, and a handle to play with.

A face, with no physics of its own: what it shows is computed by the chapters before it.
"""
