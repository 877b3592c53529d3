"""What controls say of their kinematics and tools, read from their files."""
