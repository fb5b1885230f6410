"""End points: the angles of several units at +T and −T, against the predicted envelope."""
