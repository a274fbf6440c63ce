"""What a person looks at: plots, the report, the explorer; and long work with a bar."""
