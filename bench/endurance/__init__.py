"""What is left when a program or a server is killed in the middle."""
