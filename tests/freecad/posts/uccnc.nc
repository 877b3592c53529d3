%prog1
(uccnc_post --no-show-editor)
(Exported by FreeCAD for UC-CNC)
(Post Processor: uccnc_post, version 0.0.4)
(CAM file: )
(Output Time: then)
(Units: 'mm' and 'mm/min')
(preamble: begin)
G17 (Default: XY-plane)
G54 (Default: First coordinate system)
G40 (Default: Cutter radius compensation none)
G49 (Default: Tool Length Offsets: cancel tool length)
G90 (Default: Absolute distance mode selection)
G80 (Cancel canned cycle)
(preamble: done)
(operation initialise: TC: Default Tool)
(operation start: TC: Default Tool)
(TC: Default Tool)
M6 T1
M3 S8000
(operation done: TC: Default Tool)
(operation finalised: TC: Default Tool)
(operation initialise: Profile)
(operation start: Profile)
(Profile)
(Compensated Tool Path. Diameter: 5.0)
G0 Z10.000
G0 X41.768 Y31.768
G0 Z8.000
G1 Z-0.000 F200.000
G2 X42.500 Y30.000 Z-0.000 I-1.768 J-1.768 K0.000 F600.000
G1 Y0.000 Z0.000
G2 X40.000 Y-2.500 Z0.000 I-2.500 J0.000 K-0.000
G1 X0.000
G2 X-2.500 Y0.000 Z0.000 I0.000 J2.500 K-0.000
G1 Y30.000 Z-0.000
G2 X0.000 Y32.500 Z-0.000 I2.500 J-0.000 K0.000
G1 X40.000
G2 X41.768 Y31.768 Z-0.000 I-0.000 J-2.500 K0.000
G1 Z-1.000 F200.000
G2 X42.500 Y30.000 I-1.768 J-1.768 K0.000 F600.000
G1 Y0.000
G2 X40.000 Y-2.500 I-2.500 J0.000
G1 X0.000
G2 X-2.500 Y0.000 I0.000 J2.500
G1 Y30.000
G2 X0.000 Y32.500 I2.500 J-0.000
G1 X40.000
G2 X41.768 Y31.768 I-0.000 J-2.500
G0 Z10.000
G0
(operation done: Profile)
(operation finalised: Profile)
(operation initialise: Drilling)
(operation start: Drilling)
(Drilling)
(Begin Drilling)
G0 Z10.000
G90
G98
G0 X20.000 Y15.000
G0 Z8.000
G81 Z0.000 R8.000 F200.000
G80
G0 Z8.000
G0 Z10.000
(operation done: Drilling)
(operation finalised: Drilling)
(postamble: begin)
M05 (stop spindle)
G17 (Default: XY-plane)
G54 (Default: First coordinate system)
G40 (Default: Cutter radius compensation none)
G90 (Default: Absolute distance mode selection)
G80 (Cancel canned cycle)
M30 (Stop program and rewind code)
(postamble: done)
