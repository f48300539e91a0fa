"""What has wheels: corner, axle and rigid axle, behind one protocol."""
