"""Why did two arms shake that follow each other?"""
