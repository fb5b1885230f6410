"""The extended model: its forward model, its file, and its predictions."""
