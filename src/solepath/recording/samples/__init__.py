"""Reading of recorded samples: .npz and .csv files with t, acc, gyro and pressure of one foot or of both feet."""

from .reader import SampleRecording, load_samples

__all__ = ["SampleRecording", "load_samples"]
