"""Parts in 3-D in a browser: what the report's page and the live page share, drawn by three.js."""
