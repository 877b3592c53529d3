"""LinuxCNC: its kinematics as HAL files set them up, and its tool tables."""
