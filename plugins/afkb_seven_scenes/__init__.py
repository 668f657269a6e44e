"""Source: a 7-Scenes-style folder of depth images and camera poses."""
