G21 G90 G94 (Fräsen µm)
G0 X0
G91 X1. (Übergang)
M30
