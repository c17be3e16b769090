"""A skeleton from motion alone, against partitions, trees, joints and names that are known."""
