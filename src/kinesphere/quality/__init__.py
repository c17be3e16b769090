"""What is wrong with a recording, and which way is up in it."""
