"""The chain of stages, its cache, and the backlash sum."""
