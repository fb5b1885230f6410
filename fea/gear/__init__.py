"""The whole gear with its wave generator locked: teeth, rim, bearing and their equilibrium at a torque."""
