"""What the best explanation leaves: tests of the residual, stick-slip, lack of fit, rounding."""
