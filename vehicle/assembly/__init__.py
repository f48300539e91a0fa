"""Assemblies of wheels (corner, axle, rigid axle, car) behind one protocol."""
