"""Commands to begin with: samples, a tour, the catalogue, pages in the browser, completion in the shell."""
