"""What `zwidth new` asks, and the files that it makes of the answers."""
