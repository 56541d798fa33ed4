; settings of a Duet
M201 X6000 Y6000           ; accelerations
M593 P"mzv" F47.5 S0.08    ; input shaping
