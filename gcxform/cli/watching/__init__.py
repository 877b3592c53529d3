"""The hot folder of `gcxform watch`: what is settled, what is done with it, and how it restarts."""
