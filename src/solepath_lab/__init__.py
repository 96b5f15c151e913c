"""The laboratory: what shows that solepath is right. Its command is `solepath-lab`; solepath never imports it.

It scores recipes on recordings and on emulated walks (evaluate, emulated), repeats the experiments of papers
(reproduce), damages recordings on purpose (damage), and learns the parameters of parts (train)."""
