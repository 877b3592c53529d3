"""The linear axes from circular tests in their planes."""
