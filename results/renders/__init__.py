"""Off-screen pictures of meshes and solved fields, one kind per file."""
