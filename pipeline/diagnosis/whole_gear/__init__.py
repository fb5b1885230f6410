"""A torque sweep held against the curve of the whole gear, and which of its inputs explains the rest."""
