"""What the tool does: moves as columns, their geometry and their facts."""
