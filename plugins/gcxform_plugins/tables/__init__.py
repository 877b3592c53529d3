"""What several formats of error tables share: points, positioning tests, parameters, steps."""
