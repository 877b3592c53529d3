"""What languages of controls have in common that are turned into blocks of words."""
