"""`rtcp`: from tips to axes, and back."""
