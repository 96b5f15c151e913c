// Gives a file to another app or, where a browser does not share it, to its downloads.

export async function offer(file) {
  // browsers share text, not every kind of file
  const shared = new File([file], file.name.replace(/\.jsonl$/, ".jsonl.txt"), { type: file.type || "text/plain" });
  if (navigator.canShare?.({ files: [shared] })) {
    try {
      await navigator.share({ files: [shared], title: file.name });
      return;
    } catch (error) {
      if (error.name === "AbortError") return; // somebody closed the list of apps
    }
  }
  const link = document.createElement("a");
  link.href = URL.createObjectURL(file);
  link.download = file.name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
