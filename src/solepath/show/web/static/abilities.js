// What this browser cannot do, in words.

export function bluetoothWords() {
  if (navigator.bluetooth) return "";
  const rest = "Recordings and the demonstration can be played here.";
  const { userAgent, maxTouchPoints } = navigator;
  if (!isSecureContext) return `Sensors can be reached only from a page at an https address. ${rest}`;
  if (/iPhone|iPad|iPod/.test(userAgent) || (/Macintosh/.test(userAgent) && maxTouchPoints > 1))
    return `No browser on an iPhone or iPad lets a page reach Bluetooth sensors; Chrome on an Android phone or a computer does. ${rest}`;
  if (/Chrom(e|ium)\//.test(userAgent) && /Linux/.test(userAgent) && !/Android/.test(userAgent))
    return `Chrome on Linux lets a page reach Bluetooth sensors once chrome://flags/#enable-web-bluetooth is enabled. ${rest}`;
  const name = /Firefox\//.test(userAgent) ? "Firefox" : /Safari\//.test(userAgent) && !/Chrom/.test(userAgent) ? "Safari" : "This browser";
  return `${name} has no Web Bluetooth, so that it reaches no sensors; Chrome and Edge do. ${rest}`;
}
