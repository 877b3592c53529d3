"""The version of gcxform."""

VERSION = "0.1.0"
