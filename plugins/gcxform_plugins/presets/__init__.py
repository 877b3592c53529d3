"""Machines that machine files can be like, each from what is published of it."""
