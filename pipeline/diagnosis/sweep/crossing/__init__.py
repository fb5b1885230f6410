"""Where the gap is crossed: a shifted torque reading, and first guesses of friction ahead of the teeth."""
