"""How rooms come about: lines that may bound them, faces between these, and faces that are one."""
