"""Where each view was taken: odometry, corrected by what the view shows."""
