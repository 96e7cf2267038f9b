"""How the engines get onto this machine.  Run by `make setup`; nothing in the command line imports it to do work."""
