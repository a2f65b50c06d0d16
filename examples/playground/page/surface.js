// A canvas as it is on the page: its size in CSS pixels, its pen in these pixels, and the colours of the page.
(globalThis.playground ??= {}).surface = canvas => {
    const { clientWidth: width, clientHeight: height } = canvas, dense = globalThis.devicePixelRatio || 1;
    canvas.width = Math.round(width * dense);
    canvas.height = Math.round(height * dense);
    const pen = canvas.getContext('2d'), style = getComputedStyle(canvas);
    pen.setTransform(dense, 0, 0, dense, 0, 0);
    return { pen, width, height, colour: name => style.getPropertyValue(`--${name}`) };
};
