"""What the programs that call gcxform need to be told: CAM systems, slicers, controls, senders."""
