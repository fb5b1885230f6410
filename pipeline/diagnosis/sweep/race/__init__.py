"""The race of the causes: alone, with a shifted torque reading, with friction ahead of the teeth."""
