;Exported by FreeCAD
;Post Processor: nccad_post
;CAM file: 
;Output Time: then
(TC: Default Tool)
G77      ; Move to release position
M10 O6.0 ; Stop spindle
M01 Insert tool 1
G76      ; Move to reference point to ensure correct coordinates after tool change
M10 O6.1 ; Start spindle
M01 Set spindle speed to 8000 rounds per minute
(Profile)
(Compensated Tool Path. Diameter: 5.0)
G0 Z10.0
G0 X41.76777 Y31.76777
G0 Z8.0
G1 F33.33333 X41.76777 Y31.76777 Z-0.0
G2 F100.0 I-1.76777 J-1.76777 K0.0 X42.5 Y30.0 Z-0.0
G1 F100.0 X42.5 Y0.0 Z0.0
G2 F100.0 I-2.5 J0.0 K-0.0 X40.0 Y-2.5 Z0.0
G1 F100.0 X0.0 Y-2.5 Z0.0
G2 F100.0 I0.0 J2.5 K-0.0 X-2.5 Y0.0 Z0.0
G1 F100.0 X-2.5 Y30.0 Z-0.0
G2 F100.0 I2.5 J-0.0 K0.0 X0.0 Y32.5 Z-0.0
G1 F100.0 X40.0 Y32.5 Z-0.0
G2 F100.0 I-0.0 J-2.5 K0.0 X41.76777 Y31.76777 Z-0.0
G1 F33.33333 X41.76777 Y31.76777 Z-1.0
G2 F100.0 I-1.76777 J-1.76777 K0.0 X42.5 Y30.0 Z-1.0
G1 F100.0 X42.5 Y0.0 Z-1.0
G2 F100.0 I-2.5 J0.0 K0.0 X40.0 Y-2.5 Z-1.0
G1 F100.0 X0.0 Y-2.5 Z-1.0
G2 F100.0 I0.0 J2.5 K0.0 X-2.5 Y0.0 Z-1.0
G1 F100.0 X-2.5 Y30.0 Z-1.0
G2 F100.0 I2.5 J-0.0 K0.0 X0.0 Y32.5 Z-1.0
G1 F100.0 X40.0 Y32.5 Z-1.0
G2 F100.0 I-0.0 J-2.5 K0.0 X41.76777 Y31.76777 Z-1.0
G0 F0.0 Z10.0
G0 Z10.0
(Drilling)
(Begin Drilling)
G0 F0.0 Z10.0
G90
G98
G0 F0.0 X20.0 Y15.0
G0 F0.0 Z8.0
G81 F33.33333 R8.0 X20.0 Y15.0 Z0.0
G80
G0 F0.0 Z8.0
G0 Z10.0
G77      ; Move to release position
M10 O6.0 ; Stop spindle
