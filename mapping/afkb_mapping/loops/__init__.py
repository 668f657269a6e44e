"""Loops: places seen again are recognised, checked, and the robot's way is corrected by them."""
