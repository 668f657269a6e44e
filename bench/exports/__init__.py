"""What a map weighs in each format, and how fast it is read, beside spark-dsg."""
