"""Motion-BIDS: recordings are written into a dataset of the Brain Imaging Data Structure, and read from one."""
