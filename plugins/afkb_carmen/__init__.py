"""Source: CARMEN logs of laser scans and odometry."""
