"""What a person declares: bodies, joints, forces, laws, and models made of them."""
