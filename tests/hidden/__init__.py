"""Effects hidden in made-up measurements, and the marking of a diagnosis against them.

Nothing here is shared with `pipeline.diagnosis`: other friction elements, other hardening laws,
lagged temperature, noise of its own. Only the design, the gap and its spread come from the program.
"""
