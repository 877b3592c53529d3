"""What `rtcp` writes."""
