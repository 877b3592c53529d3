"""Importers of foreign error tables, one file each."""
