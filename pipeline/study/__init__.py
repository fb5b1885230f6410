"""Studies: many designs evaluated, stored as they finish, compared."""
