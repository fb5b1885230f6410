"""The analysis and its cache, and the backlash sum."""
