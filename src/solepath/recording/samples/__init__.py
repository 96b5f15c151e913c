"""Reading of recorded samples: text tables, workbooks, Parquet and NumPy archives, of one foot or of both feet."""

from .reader import SampleRecording, load_samples

__all__ = ["SampleRecording", "load_samples"]
