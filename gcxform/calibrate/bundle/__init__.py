"""All rotary axes from balls at any poses, and where to probe them."""
