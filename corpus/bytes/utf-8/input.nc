G21 G90 (Fräsen µm)
G0 X0
M2 ; 終わり
