"""From the best set to causes: significance, rivals, and what only looks like a cause."""
