"""The evidence of sets of regressors: rows, design matrix, fit, and the search for the best set."""
