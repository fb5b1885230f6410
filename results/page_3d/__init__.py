"""3-D views of parts in a browser by three.js, common to the report's page and the live page."""
