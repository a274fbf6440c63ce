"""Stable with which hands: a hand that is known, slopes within a sector, hands of bounded activity."""
